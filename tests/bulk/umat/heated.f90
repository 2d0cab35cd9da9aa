! Isotropic elasticity with thermal expansion, in space and in plane stress: E, nu, alpha. The state variables are the position.
subroutine umat(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, time, dtime, temp, dtemp, predef, &
                dpred, cmname, ndi, nshr, ntens, nstatv, props, nprops, coords, drot, pnewdt, celent, dfgrd0, dfgrd1, noel, npt, layer, &
                kspt, jstep, kinc)
   implicit none
   character(len=80) :: cmname
   integer :: ndi, nshr, ntens, nstatv, nprops, noel, npt, layer, kspt, jstep(4), kinc, i, j
   double precision :: stress(ntens), statev(nstatv), ddsdde(ntens, ntens), sse, spd, scd, rpl, ddsddt(ntens), drplde(ntens), drpldt, &
                       stran(ntens), dstran(ntens), time(2), dtime, temp, dtemp, predef(1), dpred(1), props(nprops), coords(3), &
                       drot(3, 3), pnewdt, celent, dfgrd0(3, 3), dfgrd1(3, 3), lambda, mu, elastic(ntens)
   lambda = props(1)*props(2)/((1 + props(2))*(1 - 2*props(2)))
   mu = props(1)/(2*(1 + props(2)))
   if (ndi == 2) lambda = props(1)*props(2)/(1 - props(2)**2)
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
   elastic = dstran
   elastic(1:ndi) = elastic(1:ndi) - props(3)*dtemp
   stress = stress + matmul(ddsdde, elastic)
   statev(1:3) = coords
   statev(4) = temp + dtemp
end subroutine umat
