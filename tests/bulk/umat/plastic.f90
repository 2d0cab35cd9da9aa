! Von Mises plasticity with linear isotropic hardening, radial return: E, nu, yield stress, modulus. State: equivalent plastic strain.
subroutine umat(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, time, dtime, temp, dtemp, predef, &
                dpred, cmname, ndi, nshr, ntens, nstatv, props, nprops, coords, drot, pnewdt, celent, dfgrd0, dfgrd1, noel, npt, layer, &
                kspt, jstep, kinc)
   implicit none
   character(len=80) :: cmname
   integer :: ndi, nshr, ntens, nstatv, nprops, noel, npt, layer, kspt, jstep(4), kinc, i, j
   double precision :: stress(ntens), statev(nstatv), ddsdde(ntens, ntens), sse, spd, scd, rpl, ddsddt(ntens), drplde(ntens), drpldt, &
                       stran(ntens), dstran(ntens), time(2), dtime, temp, dtemp, predef(1), dpred(1), props(nprops), coords(3), &
                       drot(3, 3), pnewdt, celent, dfgrd0(3, 3), dfgrd1(3, 3), lambda, mu, bulk, mean, q, yield, growth, kept, along, &
                       direction(ntens)
   lambda = props(1)*props(2)/((1 + props(2))*(1 - 2*props(2)))
   mu = props(1)/(2*(1 + props(2)))
   bulk = lambda + 2*mu/3
   ddsdde = 0
   ddsdde(1:ndi, 1:ndi) = lambda
   do i = 1, ntens
      ddsdde(i, i) = ddsdde(i, i) + merge(2*mu, mu, i <= ndi)
   end do
   stress = stress + matmul(ddsdde, dstran)
   mean = sum(stress(1:3))/3
   direction = stress
   direction(1:3) = direction(1:3) - mean
   q = sqrt(1.5d0*(sum(direction(1:ndi)**2) + 2*sum(direction(ndi + 1:ntens)**2)))
   yield = props(3) + props(4)*statev(1)
   if (q <= yield) return
   growth = (q - yield)/(3*mu + props(4))
   kept = 1 - 3*mu*growth/q
   statev(1) = statev(1) + growth
   direction = direction/q
   stress = kept*q*direction
   stress(1:3) = stress(1:3) + mean
   along = 9*mu**2*(growth/q - 1/(3*mu + props(4)))
   do i = 1, ntens
      do j = 1, ntens
         ddsdde(i, j) = along*direction(i)*direction(j)
      end do
      ddsdde(i, i) = ddsdde(i, i) + kept*merge(2*mu, mu, i <= ndi)
   end do
   ddsdde(1:ndi, 1:ndi) = ddsdde(1:ndi, 1:ndi) + bulk - 2*mu*kept/3
end subroutine umat
