! Isotropic elasticity: E, nu. The first state variable counts the increments that were accepted.
subroutine umat(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, time, dtime, temp, dtemp, predef, &
                dpred, cmname, ndi, nshr, ntens, nstatv, props, nprops, coords, drot, pnewdt, celent, dfgrd0, dfgrd1, noel, npt, layer, &
                kspt, jstep, kinc)
   implicit none
   character(len=80) :: cmname
   integer :: ndi, nshr, ntens, nstatv, nprops, noel, npt, layer, kspt, jstep(4), kinc, i, j
   double precision :: stress(ntens), statev(nstatv), ddsdde(ntens, ntens), sse, spd, scd, rpl, ddsddt(ntens), drplde(ntens), drpldt, &
                       stran(ntens), dstran(ntens), time(2), dtime, temp, dtemp, predef(1), dpred(1), props(nprops), coords(3), &
                       drot(3, 3), pnewdt, celent, dfgrd0(3, 3), dfgrd1(3, 3), lambda, mu
   lambda = props(1)*props(2)/((1 + props(2))*(1 - 2*props(2)))
   mu = props(1)/(2*(1 + props(2)))
   ddsdde = 0
   do i = 1, ndi
      do j = 1, ndi
         ddsdde(i, j) = lambda
      end do
      ddsdde(i, i) = lambda + 2*mu
   end do
   do i = ndi + 1, ntens
      ddsdde(i, i) = mu
   end do
   stress = stress + matmul(ddsdde, dstran)
   sse = 0.5d0*dot_product(stress, stran + dstran)
   if (nstatv > 0) statev(1) = statev(1) + 1
   if (cmname == 'SOFTENS') ddsdde = 0.9d0*ddsdde
   if (cmname == 'TURNS') ddsdde(1, 2) = 1.5d0*ddsdde(1, 2)
   if (cmname == 'STOPS') stop
   if (cmname == 'ABORTS') call abort()
   if (cmname == 'CRASHES') stress(int(props(3), 8)) = 0
   if (cmname == 'STEPS' .and. dtime > 0.3d0) pnewdt = 0.5d0
end subroutine umat
